"""LeRobot's datasets and robots with ours, in the environment of make test-lerobot."""

import os
from importlib.metadata import version

if os.environ.get("THERMOGRASP_LEROBOT"):
    import torch  # pyright: ignore[reportMissingImports]

    if torch.version.cuda is None and "+cpu" not in version("torchvision"):
        # This torchvision is built for CUDA, as the package index has it. On a torch for the CPU alone its operators,
        # which nothing here calls, do not load, and it is not imported unless they are declared.
        torch.library.define(
            "torchvision::nms", "(Tensor dets, Tensor scores, float iou_threshold) -> Tensor"
        )
        torch.library.define(
            "torchvision::qnms", "(Tensor dets, Tensor scores, float iou_threshold) -> Tensor"
        )

collect_ignore_glob = [] if os.environ.get("THERMOGRASP_LEROBOT") else ["test_*.py"]
