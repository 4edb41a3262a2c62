"""Gains for targets: `tune` beside SciPy's differential evolution on the same motion."""

import time

import numpy as np
from scipy.optimize import differential_evolution

from lyapcheck import robots
from lyapcheck.answers.tune.search import BRIEFLY, Search
from lyapcheck.answers.tune.targets import limits_with
from lyapcheck.answers.tune.trial import Trials, Wishes, tried, tried_all
from lyapcheck.simulate.task import task_for

from .measure import ROOT

HEAD = [
    "arm",
    "worst ratio",
    "processor time",
    "sets tried",
    "evolution",
    "its time",
    "ratio",
    "rule of thumb",
]
ARMS = {"buap3": (5.0, 1.5), "ur5": (10.0, 2.0), "xarm6": (10.0, 2.0), "panda": (10.0, 2.0)}
"""Targets: overshoot in per cent and settling in s; and 0.9 of each torque limit."""
POPULATION, EVALUATIONS = 15, 400


def rows():
    """A row an arm."""
    return map(row, ARMS)


def row(name):
    """Both from the rule of thumb, for 45° of every joint by (11), stability to be shown by proof."""
    file = ROOT / "examples" / f"{name}.toml"
    arm = str(file) if file.exists() else name
    model, (overshoot, settle) = robots.load(arm), ARMS[name]
    n, wishes = model.n, Wishes(overshoot, settle, 0.9)
    bench = Trials(wishes, (task_for(n, [np.pi / 4] * n, None, None, 5.0),))
    search = Search(bench, (model,), limits_with(model), 1, "proof")
    start = time.process_time()
    found = search.run()
    ours, mine = time.process_time() - start, found.trial.worst
    first = search.first()
    start = time.process_time()
    evolved = tried(evolution(search, first), (model,), bench, exact=True).worst
    theirs = time.process_time() - start
    thumb = tried(search.set_of(first), (model,), bench, exact=True).worst
    shown = (
        f"{mine:.3f}",
        f"{ours:.0f} s",
        found.tries,
        f"{evolved:.3f}",
        f"{theirs:.0f} s",
        f"{mine / evolved:.3f}",
    )
    return [name, *shown, f"{thumb:.2f}"]


def evolution(search, first):
    """The best set of differential evolution about the rule of thumb, in the logarithms of the gains."""
    n = len(first)
    lower, upper = (first - 2.0).ravel(), (first + np.array([0.02, 2.0])).ravel()
    rng = np.random.default_rng(0)
    drawn = lower + (upper - lower) * rng.random((POPULATION - 1, 2 * n))

    def worst(points):
        sets = [search.set_of(point.reshape(n, 2)) for point in points.T]
        return np.array([t.worst for t in tried_all(sets, search.models, search.bench, BRIEFLY)])

    result = differential_evolution(
        worst,
        list(zip(lower, upper, strict=True)),
        init=np.vstack([first.ravel(), drawn]),
        maxiter=EVALUATIONS // POPULATION,
        seed=0,
        polish=False,
        vectorized=True,
        updating="deferred",
        tol=0,
    )
    return search.set_of(result.x.reshape(n, 2))
