"""Random statements of the kinds that users write, decided, and judged by an oracle of its own.

- ``generators``: one module a kind; some statements are true, false or undefined by construction;
- ``oracle``: what a statement means, in an arithmetic that shares no code with lyapcheck;
- ``judge``: a verdict against both; ``run`` and ``__main__``: many statements, by seed and index;
"""
