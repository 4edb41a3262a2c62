"""A theorem applied to a system, and that its parts are of the form that the theorem is about."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.check.letters import letters, require_sort
from lyapcheck.check.letters.words import Word, Words
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Relation
from lyapcheck.check.systems import THEOREMS
from lyapcheck.check.systems.facts import constants_of
from lyapcheck.check.systems.forms import EPS0, SHARE, Form
from lyapcheck.check.systems.system import G, System


@dataclass(frozen=True)
class Change:
    """A state as ±y plus a function of states that are not changed; y_x is the letter y of the state x."""

    state: str
    equals: Tree

    @property
    def letter(self) -> str:
        """The name of y."""
        return f"y_{self.state}"


@dataclass(frozen=True)
class Rest:
    """A vector x, and the form that xᵀ(M ẇ) is at least where the states seen by ψ are 0."""

    against: Tree
    form: Form


@dataclass(frozen=True)
class Step:
    """States that stand still; vectors x beside some, and the form that Σ xᵀ(their motion) is at least."""

    still: tuple[str, ...]
    against: tuple[tuple[str, Tree], ...]
    form: Form


@dataclass(frozen=True)
class Cascade:
    """What lets y, by which w is changed, go to 0 and e follow it: ‖M ẏ‖ <= motion, eᵀw >= the form."""

    motion: Tree
    contraction: Form


@dataclass(frozen=True)
class Argument:
    """A theorem applied to a system.

    Attributes:
        theorem: its key.
        system: the closed loop.
        energy: V without the energy of gravity.
        gravity: whether U_g(q) − U_g(q_d) + g(q_d)ᵀe is added to it.
        lower: φ.
        upper: Φ, where the theorem asks for it.
        rate: ψ.
        changes: other letters for some states in φ.
        rest: what LaSalle's theorem asks for, if ψ does not see every state.
        steps: the same in several steps, instead of ``rest``.
        where: conditions on the constants.
        small: whether some ε₀ > 0 is enough; else it is one of the constants.
        local: whether dV/dt is bounded only where ‖e‖ <= R.
        gain: ℓ, where the theorem is about a disturbance.
        cascade: what Barbalat's lemma and a cascade ask for.
    """

    theorem: str
    system: System
    energy: Tree
    gravity: bool
    lower: Form
    upper: Form | None
    rate: Form
    changes: tuple[Change, ...]
    rest: Rest | None
    where: tuple[Relation, ...]
    small: bool
    local: bool
    gain: Form | None = None
    cascade: Cascade | None = None
    steps: tuple[Step, ...] = field(default=(), metadata={"left_out": True})

    def require_well_formed(self) -> None:
        """Refuse what is not of the form that the theorem is about."""
        system, known = self.system, THEOREMS.get(self.theorem)
        require(known is not None, "theorem", self.theorem, "is not one that the checker knows")
        assert known is not None
        system.require_well_formed()
        require_sort(self.energy, "number")
        system.require_letters(self.energy, system.energies, "V")
        require(known.timed or not system.desired, "theorem", self.theorem, "is not for q_d(t)")
        require(known.upper == (self.upper is not None), "upper", "", "must be given where it is asked for")
        disturbed = system.disturbed == known.disturbed == (self.gain is not None)
        require(disturbed, "disturbance", "", "must be in the system, the theorem and its gain, or in none")
        sized = bool(system.regressors or system.sizes)
        require(
            not sized or self.theorem == "convergence", "sizes", self.theorem, "has no letters of other sizes"
        )
        timed = system.desired and not all(one.bounded for one in system.regressors)
        require(not timed, "regressor", "", "must be bounded where q_d depends on time")
        for change in self.changes:
            fits = system.shape(change.equals) == (system.size(change.state),)
            require(fits, "change", change.state, "is of another size")
        system.shape(self.energy)
        require(not (self.gravity and system.desired), "gravity", "", "has no energy where q_d(t) moves")
        local = self.theorem in ("strict", "LaSalle", "uniform", "exponential")
        require(not self.local or local, "local", self.theorem, "is no theorem with a region")
        allowed = set(constants_of(system))
        for relation in self.where:
            used = variables(relation.gap)
            fits = used <= (allowed - {EPS0} if self.small else allowed)
            require(fits, "where", ", ".join(sorted(used)), "must be about constants of this system")
        sizes = self._sees()
        for form in self.forms:
            form.require_well_formed()
            for size in (*form.sizes, *form.names):
                require(size in sizes, "size", size, "is not one of a state or function of this system")
            for tree in form.coefficients:
                used = variables(tree)
                require(used <= allowed | {SHARE}, "coefficient", ", ".join(sorted(used)), "are no constants")
        for tree in self.lower.coefficients:
            require(SHARE not in variables(tree), "lower", "s", "goes to 0 far away: bound it by constants")
        self._require_changes()
        self._require_smooth()
        require((self.theorem == "cascade") == (self.cascade is not None), "cascade", "", "has its own data")
        if self.cascade is not None:
            self._require_cascade(self.cascade, allowed)
        else:
            self._require_seen()

    @property
    def forms(self) -> list[Form]:
        """Those that it has."""
        contraction = self.cascade.contraction if self.cascade is not None else None
        rests = (step.form for step in self.to_rest)
        forms = (self.lower, self.upper, self.rate, *rests, self.gain, contraction)
        return [form for form in forms if form is not None]

    @property
    def to_rest(self) -> tuple[Step, ...]:
        """The steps of LaSalle's theorem; ``rest`` is a single one."""
        return self.steps if self.rest is None else (Step((), (("w", self.rest.against),), self.rest.form),)

    def vanishing(self) -> list[set[str]]:
        """The states that are 0 before each step, and after the last."""
        result = [self.seen(self.rate)]
        for step in self.to_rest:
            result.append(result[-1] | self.seen(step.form))
        return result

    def _sees(self) -> dict[str, tuple[str, bool]]:
        """For each size the state that it sees, and whether it grows with it without end."""
        system = self.system
        result = {f"norm_{name}": (name, True) for name in system.moving}
        for f in system.functions:
            result |= {f"norm_{f.name}": (f.of, False), f"sum_U{f.name}": (f.of, True)}
            if f.level:
                result |= {f"sum_LU{f.name}": (f.of, True), f"sum_T{f.name}": (f.of, False)}
        result |= {f"norm_{one.name}": (one.of, False) for one in system.increases}
        return result | {f"norm_{change.letter}": (change.state, True) for change in self.changes}

    @property
    def constants(self) -> set[str]:
        """The names in its bounds and conditions."""
        trees = [tree for form in self.forms for tree in form.coefficients]
        trees += [relation.gap for relation in self.where]
        trees += [self.cascade.motion] if self.cascade is not None else []
        moved = {"ad", "kg"} if self.theorem == "convergence" and self.system.desired else set[str]()
        return moved.union(*map(variables, trees))

    @property
    def changed(self) -> tuple[str, ...]:
        """The letters that others are changed to in φ."""
        return tuple(change.letter for change in self.changes)

    def seen(self, form: Form, growing: bool = False) -> set[str]:
        """The states that a form sees, or those with which it also grows."""
        sees = self._sees()
        result = (sees[size] for size in (*form.sizes, *form.names))
        return {state for state, grows in result if grows or not growing}

    def _require_changes(self) -> None:
        system, names = self.system, [change.state for change in self.changes]
        kept = {("vec", name) for name in system.moving if name not in names}
        kept |= {("vec", f.name) for f in system.functions if f.of not in names}
        kept |= {("vec", name) for name in system.diagonal} | {("var", SHARE), ("var", EPS0)}
        kept |= {("var", name) for name in system.constants}
        for change in self.changes:
            require(names.count(change.state) == 1, "change", change.state, "is changed twice")
            require(change.state in system.moving, "change", change.state, "is no state")
            require(change.state != "e", "change", "e", "is a size of its own: s and gravity depend on it")
            require_sort(change.equals, "vector")
            own: Tree = ("vec", change.letter)
            system.require_letters(change.equals, {*kept, own}, f"what {change.state} is changed to")
            words = Words((), {}, {}).expand(change.equals)
            with_own = [word for word in words if any(name == change.letter for _, name in word)]
            factor = words.get((own,))
            signs = [] if factor is None else [(abs(c), powers) for c, powers in terms_of(factor)]
            plain = with_own == [(own,)] and signs == [(1, {})]
            require(plain, "change", change.state, f"must be ±{change.letter} and what does not contain it")
        gone = {name for f in system.functions if f.of in names for name in (f.name, f"U{f.name}")}
        used = {name for _, name in letters(self.energy)}
        require(not gone & used, "change", ", ".join(sorted(gone)), "stands in V, and its state is changed")

    def _require_smooth(self) -> None:
        """s only beside e or a function of it, so that V is C¹ at e = 0."""
        words = Words(("M",), {}, {})
        of_e = {"e", *(f.name for f in self.system.functions if f.of == "e")}
        for _, powers in terms_of(words.number(self.energy)):
            if SHARE in powers:
                factors = (word for name in powers for word in words.seen.get(name, ()))
                fits = any(name in of_e for word in factors for _, name in word)
                require(fits, "V", SHARE, "stands in a term without e or a function of it: V is not C¹")

    def _require_seen(self) -> None:
        """φ grows with every state; ψ sees every state, or those that LaSalle's theorem needs."""
        system, every = self.system, set(self.system.moving)
        lost = every - self.seen(self.lower, growing=True)
        require(not lost, "lower", ", ".join(sorted(lost)), "must be seen by sizes that grow without end")
        seen = self.seen(self.rate)
        if self.theorem == "LaSalle":
            require(not (self.rest and self.steps), "steps", "", "take the place of the rest")
            self._require_steps()
            left = every - self.vanishing()[-1]
            require(not left, "rest", ", ".join(sorted(left)), "must be seen where the rest stays 0")
        else:
            require(not self.to_rest, "rest", "", "is for LaSalle's theorem alone")
            if self.theorem == "convergence":
                self._require_continuous(seen)
                seen = every
            rule = "must be seen: but for LaSalle's, a theorem asks for a rate in every state"
            require(seen == every, "rate", ", ".join(sorted(every - seen)), rule)
        if self.gain is not None:
            linear = not self.gain.sizes and all(name[5:] in every for name in self.gain.names)
            require(linear, "gain", ", ".join(self.gain.sizes), "must be linear in the norms of states")
        if self.theorem in ("exponential", "ISS"):
            for change in self.changes:  # the new letters are then norms as good as the old ones
                ends = {*system.moving, change.letter}
                words = Words((), {}, {}).expand(change.equals).items()
                fits = all(word[-1][1] in ends for word, _ in words)
                fits = fits and not any(powers for _, factor in words for _, powers in terms_of(factor))
                fits = fits and all(name in system.diagonal for word, _ in words for _, name in word[:-1])
                require(fits, "change", change.state, "must be linear, of numbers, diag(K) and states")
            for form in (self.lower, self.upper, self.rate):
                assert form is not None
                fits = len(form.sizes) == len(every) and not form.linear
                fits = fits and {*form.sizes} <= {f"norm_{x}" for x in (*system.moving, *self.changed)}
                require(fits, "form", ", ".join(form.sizes), "must be quadratic in the norms of all states")
                require(
                    all(SHARE not in variables(tree) for tree in form.coefficients), "form", SHARE, "varies"
                )

    def _require_continuous(self, seen: Collection[str]) -> None:
        """Motions of what tends to 0 are bounded where states are: g(q) alone has no bound there."""
        require(len(seen) > 0, "rate", "", "must see a state")
        for state in sorted(seen):
            words = Words((), {}, {})
            for word, factor in words.expand(self.system.motion(state)).items():
                terms = terms_of(factor)
                inner = (one for _, names in terms for name in names for one in words.seen.get(name, ()))
                free = len(terms) > 0 and any(G in one for one in (word, *inner))
                require(not free, "motion", state, "has g(q), which has no bound for q_d(t)")

    def _require_steps(self) -> None:
        """Each is about states that stand still; and what it says stands still does."""
        system, still = self.system, set[str]()
        for step, zero in zip(self.to_rest, self.vanishing(), strict=False):
            still |= zero
            for name in step.still:
                require(name in system.moving, "still", name, "is no state")
                require(self._stands(name, zero, still), "still", name, "is not shown to stand still")
                still.add(name)
            require(len(step.against) > 0, "rest", "", "needs a state that stands still")
            for state, against in step.against:
                require(state in still, "rest", state, "must stand still before the step that uses it")
                require_sort(against, "vector")
                system.require_letters(against, system.known | system.probes, "the vector at rest")

    def _stands(self, name: str, zero: Collection[str], still: Collection[str]) -> bool:
        """Whether a state stands still: its motion is 0, or A x + what stands still is, of one that does.

        A is a product of positive diagonal matrices; what stands still is made of such matrices and states.
        """
        system = self.system
        regular = {*system.gains, *(["B"] if system.friction == "positive" else [])}
        fixed = {*still, *system.diagonal, *(f.name for f in system.functions if f.of in still)}

        def constant(word: Word, of: Collection[str], factor: Tree) -> bool:
            ends = all(kind == "diag" and one in regular for kind, one in word[:-1]) and word[-1][1] in of
            return ends and variables(factor) <= {*system.constants}

        for state in sorted({name, *still}):
            motion = Words((), {}, {}).expand(system.at_zero(system.motion(state), zero))
            words = [(word, factor) for word, factor in motion.items() if terms_of(factor)]
            own = [factor for word, factor in words if constant(word, {name} - {*zero}, factor)]
            rest = sum(constant(word, fixed, factor) for word, factor in words)
            if (state == name and not words) or (
                state in still and len(own) == 1 == len(terms_of(own[0])) and rest == len(words) - 1
            ):
                return True
        return False

    def _require_cascade(self, cascade: Cascade, allowed: Collection[str]) -> None:
        """w alone is changed, to y; φ and ψ see y, φ the controller's states too; χ is about e and y."""
        every = {*self.system.moving}
        require([change.state for change in self.changes] == ["w"], "changes", "", "must be of w alone")
        require(not self.to_rest, "rest", "", "is for LaSalle's theorem alone")
        y = f"norm_{self.changes[0].letter}"
        lost = every - {"e"} - self.seen(self.lower, growing=True)
        require(not lost, "lower", ", ".join(sorted(lost)), "must be seen by sizes that grow without end")
        for name, form in (("lower", self.lower), ("rate", self.rate)):
            require(y in form.sizes, name, y, "must be one of its sizes")
            require(all(SHARE not in variables(tree) for tree in form.coefficients), name, SHARE, "varies")
        contraction = cascade.contraction
        plain = {"norm_e"} <= {*contraction.sizes} <= {"norm_e", y} and not contraction.linear
        require(plain, "contraction", ", ".join(contraction.sizes), f"must be quadratic in norm_e and {y}")
        varies = any(SHARE in variables(tree) for tree in contraction.coefficients)
        require(not varies, "contraction", SHARE, "varies")
        require_expressions((cascade.motion,))
        used = variables(cascade.motion)
        fits = used <= {*allowed, *self._sees()}
        require(fits, "motion", ", ".join(sorted(used)), "must be in sizes and constants")
        terms_of(cascade.motion)  # refuses what is no polynomial, and may have no bound
