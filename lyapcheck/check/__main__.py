"""``python -P -m lyapcheck.check CERTIFICATE…``: what is judged here is printed by ``lyapcheck.rechecking``.

Without ``-P`` Python looks for modules in the working directory first. That ends here, before anything else
is imported; a ``lyapcheck`` that lies there, or what Python imports by itself, has run by then.
"""

import sys

if not sys.flags.safe_path:
    del sys.path[0]

from lyapcheck.rechecking import main

if __name__ == "__main__":
    sys.exit(main())
