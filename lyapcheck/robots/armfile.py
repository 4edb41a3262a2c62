"""Arm files: one TOML file describes one arm."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.errors import InputError, Problem
from lyapcheck.robots import printed, trig
from lyapcheck.robots.fields import Fields, KeyPath, Notes
from lyapcheck.robots.links import Link, chain
from lyapcheck.robots.model import RobotModel
from lyapcheck.robots.number import Number


def read_arm(path: Path, known: Sequence[str] = ()) -> RobotModel:
    data = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=Fraction)
    notes = Notes(path.name, lambda key: None)
    source = data.get("source", "")
    top = Fields(data, (), notes, source)
    title = top.text("title", required=True)
    top.text("source")
    remarks = top.texts("remarks")
    gravity = top.vector("gravity", "m/s²")
    numbers: dict[str, Number] = {}
    table = top.table("numbers")
    if table is not None:
        for key in table.data:
            number = table.number(key, "")
            if number is not None:
                numbers[key] = number
    links, joints = top.tables("links"), top.tables("joints")
    model = top.table("model")
    top.close()
    bodies = links or joints or []
    n = len(bodies)
    names = tuple(body.text("name", required=True) for body in bodies)
    actuators = [_actuator(body, name, numbers) for body, name in zip(bodies, names)]
    raw_links = []
    if links:
        raw_links = [_link(body, name, numbers) for body, name in zip(links, names)]
    for body in bodies:
        body.close()
    used = [name for name, number in numbers.items() if number.ranged and not name.endswith(("viscous", "coulomb", "torque_limit"))]
    ring = trig.trig_ring(n, used)
    polys = {
        name: ring.gen(2 * n + used.index(name)) if name in used else trig.constant(ring, number.value)
        for name, number in numbers.items()
    }
    if links:
        assert gravity is not None
        built = [
            Link(*( [polys[x] for x in part] if isinstance(part, list) and isinstance(part[0], str)
                   else [[polys[x] for x in row] for row in part] if isinstance(part, list) else polys[part]
                   for part in raw))
            for raw in raw_links
        ]
        mass, potential = chain(ring, built, [trig.constant(ring, g.value) for g in gravity])
    else:
        assert model is not None
        def poly(key: str) -> Any:
            total = trig.constant(ring, 0)
            for coefficient, factors in model.raw(key, required=True):
                total += trig.constant(ring, coefficient) * printed.monomial(factors, ring, polys)
            return trig.normal_form(total)
        upper = {(i, j): poly(f"M{i + 1}{j + 1}") for i in range(n) for j in range(i, n)}
        mass = tuple(tuple(upper[min(i, j), max(i, j)] for j in range(n)) for i in range(n))
        potential = poly("potential")
        model.close()
    if notes.problems:
        raise InputError(notes.problems)
    return RobotModel(
        path.stem, title, names, ring, mass, potential,
        tuple(a[0] for a in actuators), tuple(a[1] for a in actuators), tuple(a[2] for a in actuators),
        tuple(a[3] for a in actuators), tuple(a[4] for a in actuators),
        numbers, {name: numbers[name] for name in used}, remarks,
    )


def _actuator(body, name, numbers):
    out = []
    for key, unit in (("viscous", "N·m·s/rad"), ("coulomb", "N·m"), ("torque_limit", "N·m")):
        number = body.number(key, unit)
        if number is not None:
            numbers[f"{name}_{key}"] = number
        out.append(number)
    return (*out, body.count("encoder"), body.number("gravity_bound", "N·m"))


def _link(body, name, numbers):
    def keep(key, number):
        numbers[f"{name}_{key}"] = number
        return f"{name}_{key}"
    zero = Number(Fraction(0))
    def vec(key, unit):
        items = body.vector(key, unit) or [zero] * 3
        return [keep(f"{key}_{c}", x) for c, x in zip("xyz", items)]
    axis = vec("axis", "")
    origin = vec("origin", "m")
    mass = keep("mass", body.number("mass", "kg", required=True))
    com = vec("com", "m")
    inertia = keep("inertia", body.number("inertia", "kg·m²"))
    nil = keep("nil", zero)
    # planar: along the joint axis
    rows = [[nil] * 3 for _ in range(3)]
    rows[2][2] = inertia
    return [axis, origin, mass, com, rows]
