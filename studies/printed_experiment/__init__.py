"""How far each number that the paper prints of its experiment is from what any assumed arm can do.

``make study`` runs it for the paper's gains and writes ``results.json``, which the report reads.
"""
