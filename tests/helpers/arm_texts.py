"""Arms of one link, as text, for tests to fill in."""

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
