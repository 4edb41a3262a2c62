"""A file a question: ``ask`` answers it of an arm, or, of the gate, some that differ in their gains alone.

``OPTIONS`` are what it may be asked with, and what holds where nothing is said; ``ask`` gets them, and under
``jobs`` how many processes may share a question.
"""

from lyapcheck.extensions import folders

__path__ += folders(__name__)
