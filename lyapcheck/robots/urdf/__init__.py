"""Reading URDF files: serial chains of revolute joints, exactly as far as decimals are exact."""

from lyapcheck.robots.urdf.arm import read_urdf

__all__ = ["read_urdf"]
