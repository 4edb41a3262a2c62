"""A file a question: ``ask`` answers some that differ in their gains alone, in their order.

``OPTIONS`` are what it may be asked with, and what holds where nothing is said.
"""

from lyapcheck.extensions import folders

__path__ += folders(__name__)
