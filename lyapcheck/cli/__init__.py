"""The command line, thin: parse, call, print. A file that defines ``command`` is a command."""

from lyapcheck.extensions import folders

__path__ += folders(__name__)
