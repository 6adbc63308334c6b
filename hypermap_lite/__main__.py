"""``python -m hypermap_lite``."""

import sys

from hypermap_lite.cli import main

if __name__ == "__main__":
    sys.exit(main())
