"""One family a file; each offers ``create(m)``."""

from lyapcheck.extensions import folders

__path__ += folders(__name__)
