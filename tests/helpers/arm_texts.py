"""Arms as text, for tests to fill in."""

ONE_LINK = """
title = "One link"
gravity = [0, -9.81, 0]
[[links]]
name = "j1"
axis = [0, 0, 1]
origin = [0, 0, 0]
mass = {mass}
com = [0.5, 0, 0]
inertia = 0.2
viscous = {viscous}
torque_limit = 60
{more}
"""
"""A level link in a plane: at 0 the weight pulls with its whole lever of 0.5 m."""
ONE_JOINT = """
title = "One joint"
gravity = [0, 0, -9.81]
[[links]]
name = "joint"
axis = [0, 1, 0]
origin = [0, 0, 0]
mass = 1
com = [0, 0, -0.1]
inertia = 0.02
viscous = {viscous}
torque_limit = {torque}
{more}
"""
"""A light link that hangs down at 0."""
KEYS = ("name", "axis", "origin", "mass", "com", "inertia", "viscous")


def arm_of(*links, gravity=(0, 0, -9.81)):
    """An arm file of links: what ``KEYS`` lists, and tables of further keys."""
    lines = ['title = "An arm of links"', f"gravity = {list(gravity)}"]
    for link in links:
        known = dict(zip(KEYS, link, strict=False))
        for more in link[len(KEYS) :]:
            known |= more
        lines += ["[[links]]", *(f"{key} = {_toml(value)}" for key, value in known.items())]
    return "\n".join(lines) + "\n"


def _toml(value):
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(part)}' for key, part in value.items())} }}"
    return f'"{value}"' if isinstance(value, str) else str(list(value) if isinstance(value, tuple) else value)


PLANAR = arm_of(
    ("shoulder", (0, 0, 1), (0, 0, 0), 23.902, (0, -0.091, 0), 1.266, 2.288),
    ("elbow", (0, 0, 1), (0, -0.45, 0), 3.880, (0, -0.048, 0), 0.093, 0.175),
    gravity=(0, -9.81, 0),
)
"""The links of the arm of Reyes and Kelly (1997), in a vertical plane."""
