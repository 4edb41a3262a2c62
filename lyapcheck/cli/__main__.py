"""``python -m lyapcheck.cli`` is the command ``lyapcheck``."""

from __future__ import annotations

from lyapcheck.cli.main import main

if __name__ == "__main__":
    main()
