"""What SymPy derives from U_m, beside what the checker proves of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck.errors import argument_error
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.promise import told

if TYPE_CHECKING:
    from lyapcheck.answers.derive.rows import Agreement, Formula
    from lyapcheck.robots import ArmLike

MOST_JOINTS = 7
"""Of the entries in which SymPy decides that V and dV/dt are what is printed."""
LARGEST_M = 40
"""SymPy isolates the roots of γ_m and ρ_m so far within seconds."""


@dataclass(frozen=True)
class Derivation(Answer):
    """Formulas, and what SymPy and the checker say of each.

    Args:
        ms: members of the family.
        n: joints.
        robot: the arm, empty where none was asked for.
        parts: headings with their formulas.
        rows: what was derived, and judged.
    """

    schema = "lyapcheck/derive/1"

    ms: tuple[int, ...]
    n: int
    robot: str
    parts: tuple[tuple[str, tuple[Formula, ...]], ...]
    rows: tuple[Agreement, ...]

    @property
    def agreed(self) -> bool:
        """Whether SymPy and the checker agree on all of it."""
        return all(row.agree for row in self.rows)

    def document(self) -> Document:
        """Which of the two agree, and the comparison; in detail the formulas."""
        agreed, members = sum(row.agree for row in self.rows), ", ".join(map(str, self.ms))
        mark, more = "✓" if self.agreed else "✗", len(self.rows) - MOST_ROWS
        title = f"{mark} SymPy and the checker agree on {agreed} of {len(self.rows)} derivations"
        arm = f", arm {self.robot}" if self.robot else ""
        return Document(
            title,
            (self.table(MOST_ROWS), *([Bullets((f"{more} more: -v lists them",))] if more > 0 else [])),
            NOTES,
            (f"for m = {members} and n = {self.n}{arm}; -v shows the formulas",),
            (*([self.table()] if more > 0 else []), *self.formulas()),
            next=command("check", "published.py", "--m", ",".join(map(str, self.ms)), *CLAIMS),
        )

    def formulas(self) -> Iterator[Section]:
        """The formulas under their headings."""
        for title, formulas in self.parts:
            yield Section(title, tuple(block for one in formulas for block in one.blocks()))

    def section(self) -> Section:
        """The same for a report."""
        return Section(
            "What SymPy derives, and what the checker says of it",
            (Paragraph(INTRODUCTION), self.table(), Paragraph(NOTES[0]), *self.formulas()),
        )

    def table(self, most: int | None = None) -> Table:
        """A row a derivation, those that disagree first."""
        heads = ("agree", "what", "SymPy derives", "the checker")
        rows = sorted(self.rows, key=lambda row: row.agree)[:most]
        cells = (("yes" if row.agree else "no", row.what, row.derived, self._judged(row)) for row in rows)
        return Table(heads, tuple(cells), align="llll", keys=2, drop=(2,))

    def data(self) -> dict[str, Any]:
        """``formulas`` by part, and ``results``: a row a derivation."""
        formulas = [{"part": title, **formula.data()} for title, several in self.parts for formula in several]
        rows = [row.data() for row in self.rows]
        asked = {"m": list(self.ms), "n": self.n, "robot": self.robot or None}
        return {**asked, "agree": self.agreed, "formulas": formulas, "results": rows}

    def _judged(self, row: Agreement) -> str:
        beside = f", claim {row.claim}" if row.claim else f", {row.certified}" if row.certified else ""
        return f"{told(row.promise, row.verdict)} [{row.grade}]{beside}"


MOST_ROWS = 15
CLAIMS = ("--only", "12", "--only", "15")
"""The claims of the paper that V and dV/dt belong to."""
INTRODUCTION = (
    "SymPy derives each formula and number from U_m alone. The checker proves the same without SymPy. "
    "Both agree where the first column says yes."
)
NOTES = (
    "Equalities are decided by polynomials over the rationals: s = sinh x, cosh² = 1 + s², a letter for each "
    "entry of M, C and the gains. C is the matrix of the Christoffel symbols, H = diag(h′(q̃)), "
    "h_v = h(q̇), u_i² = 2m U(q̃_i), κ_p the diagonal of K_p.",
    "From these expressions come the graph that optimisers see, NumPy's V and dV/dt and the compiled loops.",
)


def derivation(m: int | Sequence[int] = 2, n: int = 2, robot: ArmLike | None = None) -> Derivation:
    """Derive the formulas of the family, V and dV/dt from U_m by SymPy. The checker verifies each.

    Args:
        m: one order of the family, or several.
        n: number of joints. An arm has its own.
        robot: an arm, its name or the path of its file.

    Raises:
        InputError: an m or n out of range, an arm that cannot be read or whose M(q) is too long.

    Soundness: SymPy uses normal forms of polynomials only. `verdict` is the checker's verdict on statements
        written from the derived formulas.

    References: (6), (8), (11), (12), (13), (15) of reyes2019family.

    Example:
        >>> found = derivation(2)
        >>> found.agreed, len(found.rows)
        (True, 6)
        >>> found.rows[2].derived
        '1 positive root, γ = 1.053569219'
    """
    from lyapcheck.answers.derive import rows
    from lyapcheck.derive import written_arm
    from lyapcheck.derive.family import member
    from lyapcheck.robots import arm_of

    ms = tuple([m] if isinstance(m, int) else m)
    for one in ms:
        require_up_to("m", one, LARGEST_M)
    model = None if robot is None else arm_of(robot)
    joints = n if model is None else model.n
    require_up_to("n", joints, MOST_JOINTS)
    arm = None if model is None else written_arm(model)
    members = [member(one) for one in ms]
    judged = [row for one in members for row in rows.of_member(one)] + rows.of_loop(joints)
    shown = [*map(rows.family, members), rows.value(), rows.rate()]
    if model is not None and arm is not None:
        judged += rows.of_arm(model, arm)
        shown.append(rows.arm(model, arm))
    return Derivation(ms, joints, "" if model is None else model.name, tuple(shown), tuple(judged))


def require_up_to(name: str, value: int, most: int) -> None:
    """Refuse a number that is not from 1 to another.

    Raises:
        InputError: it is not.
    """
    if not 1 <= value <= most:
        raise argument_error(name, value, f"must be from 1 to {most}", "give 2")
