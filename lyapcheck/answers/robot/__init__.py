"""What is known of an arm: properties 2.1–2.8, certified constants, and the numbers all of it rests on."""

from lyapcheck.robot_report.build import RobotReport, build

__all__ = ["RobotReport", "build"]
