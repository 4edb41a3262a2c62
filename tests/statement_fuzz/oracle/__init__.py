"""The meaning of statements, point by point, in an arithmetic of its own.

Expressions are partial real functions. At a point an expression has a value, has certainly none
(:class:`numbers.Undefined`), or is too close to call (:class:`numbers.Unsure`), which never is an objection.
"""
