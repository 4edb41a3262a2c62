"""Closed loops for every n as data, and theorems of stability: what each concludes, and why.

- ``system``: the arm (1) under a torque that is an expression; how letters move, and what is left at rest;
- ``facts``: how large the letters are, from the properties of the arm, gains and functions;
- ``forms``: quadratic forms in such sizes, when they are positive, and which states they see;
- ``conditions``: that the conditions of an argument can be met.

Common to all theorems: at e = 0, w = 0 and all other states 0, nothing moves and V = 0; V >= φ, positive
definite in sizes that see every state, of a cascade all but e, and that grow without end with it (its
coefficients are constants); V is C¹. Then

- strict: dV/dt <= −ψ, ψ positive definite in sizes that see every state; nothing depends on time;
- LaSalle: ψ sees some states only; nothing depends on time. Motions end in an invariant set with ψ = 0:
  there what ψ sees is 0 at all times. Then step by step. A state that is constant there has no motion
  (that of w is M ẇ), so Σ xᵀ(motion) = 0 for any vectors x; where that is at least χ, positive definite in
  its sizes, what χ sees is 0 too. States that are 0 are constant. So is y if its motion is 0 where these
  are 0; or if that of a constant state is then A y + c, as y = −A⁻¹c: A a product of positive diagonal
  matrices and a number, c of constant matrices and states. After the last step every state is 0: the set
  is the origin;
- uniform: as strict, and V <= Φ; as no time stands in φ, Φ and ψ, q_d may depend on it;
- exponential: as uniform; φ, Φ and ψ are quadratic forms in the norms of all states, with constants.
- ISS: as exponential, with an unknown torque d, ‖d‖ <= delta: dV/dt <= −ψ + delta·ℓ, ℓ linear in these norms.
- cascade: w = ±y + a(e), a(0) = 0. φ sees y and the states of the controller, and grows with them; so all of
  them are bounded. With d/dt ½‖e‖² = −eᵀw and eᵀw >= χ, quadratic in ‖e‖ and ‖y‖ with a positive coefficient
  of ‖e‖², e is bounded too, and goes to 0 if y does. So motions go on for all time, and ‖M ẏ‖, at most a
  polynomial in sizes, is bounded: y is uniformly continuous. ψ is positive definite with constants and sees
  y, so ‖y‖² has a finite integral. By Barbalat's lemma y → 0; then e → 0 and w → 0. Stability is not said.
- convergence: as uniform, but ψ sees some states only, and conclusions are less. V falls, so the origin is
  stable and all motions are bounded, and go on for all time. The motions of states that ψ sees are then
  bounded (M⁻¹ by 1/mu; all letters but g(q) where states are, with ‖q̈_d‖ <= ad and ‖dg‖ <= kg ‖e‖), so ψ
  is uniformly continuous. Its integral is at most V at first. By Barbalat's lemma ψ → 0; so do the states
  that it sees.

``local``: dV/dt <= −ψ as long as ‖e‖ <= R. Where ‖e‖ <= R and V is below the least φ on ‖e‖ = R, it stays so;
with time in V, where Φ is below it, whatever the initial time.

A size sees a state if it is 0 only where the state is: norm_x of the state x, norm_f and sum_Uf of a
function f of it. norm_x and sum_Uf grow with it without end, norm_f perhaps not. Letters may be changed in φ:
x = ±y + a function of the states that are not changed is a homeomorphism that leaves 0 and infinity in place.

s = 1/(1 + ‖e‖) has no derivative at e = 0. In a term of V that has e or f(e) beside it, at most f_secant ‖e‖,
the gradient of s is multiplied by what vanishes there: the term is C¹, and u leaves no trace in dV/dt.

References: ``khalil2002nonlinear``, chapter 4; ``kelly2005control``, chapters 2 and 4.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Theorem:
    """What it is called, what it concludes, where it is proved, and whether q_d may depend on time."""

    name: str
    conclusion: str
    reference: str
    timed: bool = False
    upper: bool = False
    disturbed: bool = False


THEOREMS = {
    "strict": Theorem(
        "Lyapunov's direct method", "globally asymptotically stable", "kelly2005control, chapter 2"
    ),
    "LaSalle": Theorem(
        "LaSalle's theorem", "globally asymptotically stable", "khalil2002nonlinear, theorem 4.4"
    ),
    "uniform": Theorem(
        "Lyapunov's direct method for systems that depend on time",
        "globally uniformly asymptotically stable",
        "khalil2002nonlinear, theorem 4.9",
        timed=True,
        upper=True,
    ),
    "exponential": Theorem(
        "Lyapunov's direct method with quadratic bounds",
        "globally exponentially stable",
        "khalil2002nonlinear, theorem 4.10",
        timed=True,
        upper=True,
    ),
    "ISS": Theorem(
        "a Lyapunov function for input-to-state stability",
        "globally input-to-state stable in a torque d with ‖d‖ ≤ delta",
        "khalil2002nonlinear, chapter 4",
        timed=True,
        upper=True,
        disturbed=True,
    ),
    "convergence": Theorem(
        "the theorem of LaSalle and Yoshizawa",
        "globally uniformly stable, and all motions are bounded",
        "khalil2002nonlinear, theorem 8.4",
        timed=True,
        upper=True,
    ),
    "cascade": Theorem(
        "Barbalat's lemma and a cascade",
        "globally attractive, with all states bounded (nothing is said of its stability)",
        "khalil2002nonlinear, lemma 8.2",
        timed=True,
    ),
}
