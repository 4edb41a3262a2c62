"""``python -P -m lyapcheck`` is the command ``lyapcheck``; see ``check.__main__`` for what ``-P`` is for."""

import sys

if not sys.flags.safe_path:
    del sys.path[0]

from lyapcheck.cli.main import main

if __name__ == "__main__":
    main()
