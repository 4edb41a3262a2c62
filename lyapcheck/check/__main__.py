"""``python -m lyapcheck.check CERTIFICATE…``: what is judged here is printed by ``lyapcheck.rechecking``."""

from __future__ import annotations

import sys

from lyapcheck.rechecking.main import main

if __name__ == "__main__":
    sys.exit(main())
