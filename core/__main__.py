"""`python -m thermograsp`: the command line without the console script."""

import sys

from thermograsp.cli import main

if __name__ == "__main__":
    sys.exit(main())
