"""λmin(M), λmax(M) = β_M, k_c, k_g and every k_gi of an arm, enclosed in floating point."""

from lyapcheck._types import SEED
from lyapcheck.constants.arm import RobotConstants, arm_constants, robot_bounds, robot_constants
from lyapcheck.constants.constant import ConstantResult

__all__ = ["SEED", "ConstantResult", "RobotConstants", "arm_constants", "robot_bounds", "robot_constants"]
