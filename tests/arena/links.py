"""Two unit bodies one behind the other, for files of the arena."""

from fractions import Fraction as F

from lyapcheck.check.loop.chain import RigidLink


def vector(*values: int) -> tuple[F, ...]:
    return tuple(map(F, values))


TURN = (vector(1, 0, 0), vector(0, 1, 0), vector(0, 0, 1))
NOTHING = (vector(0, 0, 0),) * 3
AXIS, ALONG = vector(0, 0, 1), vector(1, 0, 0)
LINKS = (
    RigidLink(AXIS, vector(0, 0, 0), F(1), ALONG, NOTHING, TURN),
    RigidLink(AXIS, ALONG, F(1), ALONG, NOTHING, TURN),
)
