"""A claim, and the proof that is a list of claims."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

from lyapcheck.claims.case import Case
from lyapcheck.claims.statements import Statement
from lyapcheck.errors import InputError, Problem

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
        check_ids(other, ids, script)
        wanted = other.needed(ids)
        for name, claim in other.claims.items():
            if name in wanted:
                self.claims.setdefault(name, replace(claim, section=section or claim.section))

    def order(self, file: str) -> list[Claim]:
        """The claims so that each comes after all it uses; otherwise in the order of the text.

        Raises:
            InputError: a claim uses an id that does not exist, or itself by way of others.
        """
        problems = [
            Problem(
                file,
                None,
                claim.id,
                used,
                "uses a claim that the script does not make",
                "add it or drop the use",
            )
            for claim in self.claims.values()
            for used in claim.uses
            if used not in self.claims
        ]
        if problems:
            raise InputError(problems)
        done: dict[str, Claim] = {}
        for claim in self.claims.values():
            self._visit(claim, done, [], file)
        return list(done.values())

    def _visit(self, claim: Claim, done: dict[str, Claim], path: list[str], file: str) -> None:
        if claim.id in path:
            circle = " → ".join([*path[path.index(claim.id) :], claim.id])
            raise InputError(
                Problem(file, None, claim.id, circle, "the claims use each other in a circle", "break it")
            )
        if claim.id in done:
            return
        for used in claim.uses:
            self._visit(self.claims[used], done, [*path, claim.id], file)
        done[claim.id] = claim

    def needed(self, ids: Iterable[str]) -> set[str]:
        """The ids and everything they use, directly or not."""
        found: set[str] = set()
        waiting = list(ids)
        while waiting:
            claim = waiting.pop()
            if claim not in found:
                found.add(claim)
                waiting.extend(self.claims[claim].uses)
        return found
