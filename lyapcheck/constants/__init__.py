"""λmin(M), λmax(M) = β_M, k_c, k_g and every k_gi of an arm, from both sides."""

from lyapcheck._types import SEED
from lyapcheck.constants.arm import (
    ConstantResult,
    RobotConstants,
    arm_constants,
    robot_bounds,
    robot_constants,
)

__all__ = ["SEED", "ConstantResult", "RobotConstants", "arm_constants", "robot_bounds", "robot_constants"]
