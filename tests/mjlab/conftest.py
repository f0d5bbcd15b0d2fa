"""mjlab's own task with fingertips that feel heat, in the environment of make test-mjlab."""

import os

collect_ignore_glob = [] if os.environ.get("THERMOGRASP_MJLAB") else ["test_*.py"]
