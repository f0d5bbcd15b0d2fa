"""Classifiers that learn materials from examples: a support vector machine on principal components, and a small
recurrent net. Both see the voltages of as many fresh touches as they are given, and their labels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermograsp.bench.identify.touches import Touches, times
from thermograsp.errors import MissingDependencyError, install

_COMPONENTS = 12
_PENALTIES, _WIDTHS = (1e2, 1e3, 1e4), (0.03, 0.1)
_CHUNK = 5  # samples that the net sees at once
_HIDDEN, _BATCH, _EPOCHS = 48, 128, 60


def support_vectors(train: Touches, test: Touches, seconds: float) -> np.ndarray:
    """(N,) labels by SVM + PCA, whitened components, the penalty chosen by three-fold cross-validation on the training
    touches. Raises MissingDependencyError without scikit-learn."""
    try:
        from sklearn.decomposition import PCA
        from sklearn.model_selection import GridSearchCV
        from sklearn.pipeline import make_pipeline
        from sklearn.svm import SVC
    except ImportError as error:
        raise MissingDependencyError(f"the SVM needs scikit-learn: {install('bench')}") from error
    count = len(times(seconds))
    model = make_pipeline(PCA(_COMPONENTS, whiten=True, random_state=0), SVC())
    search = GridSearchCV(model, {"svc__C": _PENALTIES, "svc__gamma": _WIDTHS}, cv=3)
    search.fit(train.voltage[:, :count], train.label)
    return search.predict(test.voltage[:, :count])


def recurrent_net(
    train: Touches, test: Touches, windows: Sequence[float], classes: int, seed: int
) -> dict[float, np.ndarray]:
    """(N,) labels at each contact time by one gated recurrent net of 48 units that is asked after every 50 ms. Raises
    MissingDependencyError without PyTorch."""
    try:
        import torch  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingDependencyError(f"the recurrent net needs PyTorch: {install('torch')}") from error
    torch.manual_seed(seed)
    mean, spread = train.voltage.mean(), train.voltage.std()

    def chunks(touches: Touches) -> torch.Tensor:
        scaled = (touches.voltage - mean) / spread
        shaped = scaled.reshape(len(touches), -1, _CHUNK)
        slope = np.diff(shaped.mean(axis=2), axis=1, prepend=shaped.mean(axis=2)[:, :1])
        return torch.tensor(np.concatenate((shaped, 20 * slope[:, :, None]), axis=2), dtype=torch.float32)

    class Net(torch.nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.cells = torch.nn.GRU(_CHUNK + 1, _HIDDEN, batch_first=True)
            self.head = torch.nn.Linear(_HIDDEN, classes)

        def forward(self, x: torch.Tensor) -> torch.Tensor:
            return self.head(self.cells(x)[0])

    net, inputs = Net(), chunks(train)
    labels = torch.tensor(train.label)
    rng = np.random.default_rng(seed)
    steps = _EPOCHS * -(-len(train) // _BATCH)
    optimizer = torch.optim.Adam(net.parameters(), lr=5e-3)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, max_lr=1e-2, total_steps=steps)
    for _ in range(_EPOCHS):
        for batch in np.array_split(rng.permutation(len(train)), -(-len(train) // _BATCH)):
            scores = net(inputs[batch])
            wanted = labels[batch][:, None].expand(-1, scores.shape[1])
            loss = torch.nn.functional.cross_entropy(scores.flatten(0, 1), wanted.flatten())
            optimizer.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(net.parameters(), 1.0)
            optimizer.step()
            schedule.step()
    with torch.no_grad():
        scores = net(chunks(test))
    return {window: scores[:, len(times(window)) // _CHUNK - 1].argmax(dim=1).numpy() for window in windows}
