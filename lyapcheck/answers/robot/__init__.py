"""What is known of an arm: properties 2.1–2.8, certified constants, and the numbers all of it rests on."""

from lyapcheck.answers.robot.build import build
from lyapcheck.answers.robot.report import RobotReport

__all__ = ["RobotReport", "build"]
