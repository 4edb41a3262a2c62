"""A claim, and the proof that is a list of claims."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

from lyapcheck.claims.case import Case
from lyapcheck.claims.order import needed
from lyapcheck.claims.statements import Statement

StatementOf = Callable[[Case], Statement]


@dataclass(frozen=True)
class Claim:
    """One step of a proof.

    Attributes:
        id: the name by which other claims use it.
        says: the statement as a reader sees it.
        place: where the text makes it.
        section: the part of the text under which reports list it.
        uses: the claims it rests on.
        statement: the statement as data, for a case.
    """

    id: str
    says: str
    place: str
    section: str
    uses: tuple[str, ...]
    statement: StatementOf


@dataclass
class Proof:
    """A proof: claims in the order of the text, each of which may use others.

    In a script, write ``proof = Proof("name", "title")`` and decorate one function of the case per claim::

        @proof.claim("7a", "‖h_m(x)‖ ≤ √n γ_m", place="(7)")
        def bounded(case):
            return norm_bound(h(case.m, x), case.n, sqrt(case.n) * gamma(case.m))
    """

    name: str
    title: str
    reference: str = ""
    claims: dict[str, Claim] = field(default_factory=dict)

    def claim(
        self, claim_id: str, says: str, *, place: str = "", section: str = "", uses: Iterable[str] = ()
    ) -> Callable[[StatementOf], StatementOf]:
        """Add a claim whose statement, for a case, is what the decorated function returns."""

        def add(statement: StatementOf) -> StatementOf:
            if claim_id in self.claims:
                raise ValueError(f"two claims have the id {claim_id!r}")
            self.claims[claim_id] = Claim(claim_id, says, place, section, tuple(uses), statement)
            return statement

        return add

    def add(self, claim_id: str, says: str, statement: Statement, **about: object) -> None:
        """Add a claim whose statement does not depend on the case."""
        self.claim(claim_id, says, **about)(lambda case: statement)  # type: ignore[arg-type]

    def adopt(self, script: str, *ids: str, section: str = "") -> None:
        """Take claims from another proof script, with all that they use, under the ids they have there.

        Args:
            script: a path, or the name of a script that comes with lyapcheck.
            ids: the claims wanted; those that this proof has already are left as they are.
            section: where reports list them; as in the other script by default.

        Raises:
            InputError: there is no such script, or no such claim in it.
        """
        from lyapcheck.claims.script import check_ids, find_script, load_proof

        other = load_proof(find_script(script))
        check_ids(other.claims, ids, script)
        wanted = needed(other.claims, ids)
        for name, claim in other.claims.items():
            if name in wanted:
                self.claims.setdefault(name, replace(claim, section=section or claim.section))
