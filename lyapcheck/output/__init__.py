"""Every answer as text, Markdown, HTML, LaTeX, CSV, JSON, SARIF, JUnit or GitHub annotations.

An answer says three things, see :class:`~lyapcheck.output.answer.Answer`: a document for people, data for
programs, annotations for systems that run checks. A file that defines ``render`` is a format; escaping stands
in :mod:`~lyapcheck.output.escapes` and nowhere else.
"""

from lyapcheck.extensions import folders

__path__ += folders(__name__)
