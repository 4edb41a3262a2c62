"""A claim, and the proof that is a list of claims."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from inspect import Parameter, signature
from typing import Any, Protocol, TypeVar

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.errors import InputError, Problem
from lyapcheck.verdicts import STANDS

# --- The case a claim is decided for: m, n, a robot and gains, and which of them a statement looked at.


class Lacking(Exception):
    """A statement needs something that this case does not have. The claim is then undecided."""


def lacking(reason: str) -> Lacking:
    """Raise this in a claim if the text does not cover the case. The claim is then undecided."""
    return Lacking(reason)


class Case:
    """Everything that a statement may depend on. ``read`` records each use.

    Args:
        m: the order of h_m.
        n: the number of joints.
        robot: a model with that many joints, or none.
        gains: the gain set for this m, or none.
    """

    def __init__(self, m: int, n: int, robot: Any = None, gains: Any = None) -> None:
        values = {"m": m, "n": n, "robot": robot, "gains": gains}
        self.read: set[str] = set()

        def look(*names: str) -> Any:
            self.read.update(names)
            return values[names[0]]

        self._look = look

    @property
    def m(self) -> int:
        """The member of the family."""
        return int(self._look("m"))

    @property
    def n(self) -> int:
        """The number of joints."""
        return int(self._look("n"))

    @property
    def robot(self) -> Any:
        """The robot model; its n is the case's."""
        model = self._look("robot", "n")
        if model is None:
            raise Lacking("this claim is about a robot; name one with --robot")
        return model

    @property
    def gains(self) -> Any:
        """The gain set for this m."""
        gains = self._look("gains", "m", "n")
        if gains is None:
            raise Lacking(f"no gain set has m = {self.m}; give a file that has one with --gains")
        return gains


# --- Claims in an order in which each comes after all that it uses.


class Ordered(Protocol):
    """What has an id and uses others."""

    @property
    def id(self) -> str:
        """The name by which others use it."""
        ...

    @property
    def uses(self) -> tuple[str, ...]:
        """The ids that it uses."""
        ...


S = TypeVar("S", bound=Ordered)


def in_order(claims: Mapping[str, S], file: str) -> list[S]:
    """The claims so that each comes after all it uses; otherwise as they are.

    Raises:
        InputError: a claim uses an id that does not exist, or itself by way of others.
    """
    rule, repair = "uses a claim that the script does not make", "add it or drop the use"
    problems = [
        Problem(file, None, claim.id, used, rule, repair)
        for claim in claims.values()
        for used in claim.uses
        if used not in claims
    ]
    if problems:
        raise InputError(problems)
    done: dict[str, S] = {}
    for claim in claims.values():
        path = [claim.id]
        while path:
            waiting = next((used for used in claims[path[-1]].uses if used not in done), None)
            if waiting is None:
                done[path[-1]] = claims[path[-1]]
                path.pop()
            elif waiting in path:
                circle = " → ".join([*path[path.index(waiting) :], waiting])
                raise InputError(
                    Problem(file, None, waiting, circle, "the claims use each other in a circle", "break it")
                )
            else:
                path.append(waiting)
    return list(done.values())


def needed(claims: Mapping[str, S], ids: Iterable[str]) -> set[str]:
    """The ids and everything they use, directly or not."""
    result: set[str] = set()
    waiting = list(ids)
    while waiting:
        claim = waiting.pop()
        if claim not in result:
            result.add(claim)
            waiting.extend(claims[claim].uses)
    return result


StatementOf = Callable[[Case], Statement]
ARGUMENTS = ("m", "n", "robot", "gains")
"""What the function of a claim may ask for, by the names of its arguments."""


@dataclass(frozen=True)
class Claim:
    """One step of a proof.

    Attributes:
        id: the name by which other claims use it.
        says: a description for the reader.
        place: the place in the text.
        section: the part of the text, for reports.
        uses: the claims that it uses.
        statement: the statement as data, for a case.
        stands: ``quoted``, ``implied`` or ``ours``. A claim of ours is no error of the text.
    """

    id: str
    says: str
    place: str
    section: str
    uses: tuple[str, ...]
    statement: StatementOf
    stands: str


@dataclass
class Proof:
    """A proof: claims in the order of the text. A claim may use others.

    In a script, write ``proof = Proof("name", "title")`` and decorate one function per claim. The function
    gets the arguments that it names: m, n, robot and gains. ``case`` has all four::

        @proof.claim("7a", "‖h_m(x)‖ ≤ √n γ_m", "(7)")
        def _(m, n):
            return norm_bound(h(m, x), n, sqrt(n) * gamma(m))

    ``stands`` says whose sentences the claims are, unless one says otherwise: ``ours``, ``quoted`` or
    ``implied``.
    """

    name: str
    title: str
    reference: str = ""
    stands: str = "ours"
    claims: dict[str, Claim] = field(default_factory=dict)
    _section: str = field(default="", init=False, repr=False)
    _stands: str = field(default="", init=False, repr=False)

    def section(self, title: str, stands: str = "") -> None:
        """List the claims that follow under a part of the text, as sentences of whom ``stands`` says."""
        self._section, self._stands = title, stands

    def claim(
        self,
        claim_id: str,
        says: str,
        place: str = "",
        *,
        section: str | None = None,
        uses: Iterable[str] = (),
        stands: str = "",
    ) -> Callable[[Callable[..., Statement]], Callable[..., Statement]]:
        """Add a claim whose statement is what the decorated function returns for the arguments it names.

        Args:
            claim_id: the name by which other claims use it.
            says: the statement as a reader sees it.
            place: where the text makes it.
            section: the part of the text; by default the one that :meth:`section` named last.
            uses: the claims it rests on.
            stands: whose sentence it is; by default what the section says, else the proof.

        Raises:
            ValueError: the id is taken, the function asks for something else, or nobody says such a sentence.
        """
        listed, whose = self._section if section is None else section, stands or self._stands or self.stands
        if whose not in STANDS:
            raise ValueError(f"{claim_id}: stands={whose!r} is none of {', '.join(STANDS)}; take one of them")

        def add(statement: Callable[..., Statement]) -> Callable[..., Statement]:
            if claim_id in self.claims:
                raise ValueError(f"two claims have the id {claim_id!r}")
            of_case = _of_case(claim_id, statement)
            self.claims[claim_id] = Claim(claim_id, says, place, listed, tuple(uses), of_case, whose)
            return statement

        return add

    def add(
        self,
        claim_id: str,
        says: str,
        statement: Statement | Callable[..., Statement],
        place: str = "",
        **about: Any,
    ) -> None:
        """Add a claim in one line: a statement that is the same in every case, or a function as above."""
        given = statement if callable(statement) else lambda: statement
        self.claim(claim_id, says, place, **about)(given)

    def add_theorem(
        self,
        claim_id: str,
        says: str,
        theorem: Stable | StableArm,
        place: str = "",
        *,
        uses: Iterable[str] = (),
    ) -> None:
        """Add a theorem about a system, and before it a claim for each group of its obligations.

        They are called ``<id>.origin``, ``.above``, ``.rate`` and so on, and show where an argument breaks;
        the certificate of the theorem itself has the proofs of them all.
        """
        groups: dict[str, list[tuple[str, Statement]]] = {}
        try:
            theorem.require_well_formed()
            for name, obligation in theorem.obligations():
                groups.setdefault(_group(name), []).append((name, obligation))
        except Refused:
            groups.clear()  # the claim itself says what is wrong with it
        names = [f"{claim_id}.{group}" for group in groups]
        for name, (group, parts) in zip(names, groups.items(), strict=True):
            self.add(
                name,
                f"{claim_id}: {OBLIGATIONS.get(group, f'{group} is one of its class')}",
                parts[0][1] if len(parts) == 1 else AllOf(tuple(parts)),
                place,
            )
        self.add(claim_id, says, theorem, place, uses=[*names, *uses])

    def adopt(self, script: str, *ids: str, section: str = "", stands: str = "") -> None:
        """Take claims from another proof script, with all that they use, under the ids they have there.

        Args:
            script: a path, or the name of a script that comes with lyapcheck.
            ids: the claims wanted; those that this proof has already are left as they are.
            section: where reports list them; as in the other script by default.
            stands: whose sentences the claims wanted are; as in the other script by default.

        Raises:
            InputError: there is no such script, or no such claim in it.
        """
        from lyapcheck.claims.script import check_ids, find_script, load_proof

        other = load_proof(find_script(script))
        check_ids(other.claims, ids, script)
        wanted = needed(other.claims, ids)
        for name, claim in other.claims.items():
            if name in wanted:
                whose = stands if stands and name in ids else claim.stands
                self.claims.setdefault(name, replace(claim, section=section or claim.section, stands=whose))


OBLIGATIONS = {
    "origin": "nothing moves at the origin, and V = 0 there",
    "above": "V is at least a form that is positive definite and grows without end",
    "below": "V is at most a form without time",
    "rate": "dV/dt is at most a negative form",
    "rest": "nothing but the origin stays where dV/dt may vanish",
    "cascade": "the changed letter moves continuously, and the error follows it",
    "arm": "the arm has the constants, and they meet the conditions",
}


def _group(obligation: str) -> str:
    """The group of an obligation by its name: what stands before a comma or colon."""
    name = obligation.split(",", maxsplit=1)[0].split(":", maxsplit=1)[0]
    if name.startswith(("origin", "V at")):
        return "origin"
    if name.startswith("rest"):
        return "rest"
    return "arm" if name in ("M", "beta", "kc", "kg", "km", "kc2") or name.startswith("condition") else name


def _of_case(claim_id: str, statement: Callable[..., Statement]) -> StatementOf:
    """A function of the arguments it names as one of the case; arguments with a default keep it.

    Raises:
        ValueError: one is not to be had.
    """
    parameters = signature(statement).parameters.values()
    names = [one.name for one in parameters if one.default is Parameter.empty]
    for name in names:
        if name not in (*ARGUMENTS, "case"):
            known = ", ".join(ARGUMENTS)
            raise ValueError(f"the function of {claim_id!r} asks for {name!r}; it may ask for {known}")
    return lambda case: statement(**{name: case if name == "case" else getattr(case, name) for name in names})
