"""Inverse dynamics of a URDF in floating point by Newton's and Euler's equations, for comparison only.

It shares no code with lyapcheck: another XML reader, angles by sines and cosines, torques by recursion over
forces link by link, and nothing merged.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

RIGHT = np.pi / 2


class Arm:
    """The torque that moves the named joints of a URDF as told; all other joints are at rest at 0."""

    def __init__(self, path, moving):
        robot = ET.parse(path).getroot()
        self.links = {link.get("name"): link.find("inertial") for link in robot.findall("link")}
        joints = robot.findall("joint")
        self.children: dict[str, list[ET.Element]] = {}
        for joint in joints:
            self.children.setdefault(joint.find("parent").get("link"), []).append(joint)
        below = {joint.find("child").get("link") for joint in joints}
        self.root = next(name for name in self.links if name not in below)
        self.moving = moving

    def torque(self, q, w, a, gravity=(0.0, 0.0, -9.81)):
        """The torques for angles q, rates w and accelerations a."""
        self.state = {name: (q[i], w[i], a[i]) for i, name in enumerate(self.moving)}
        self.tau = dict.fromkeys(self.moving, 0.0)
        self._down(self.root, np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3), -np.array(gravity))
        return np.array([self.tau[name] for name in self.moving])

    def _down(self, link, turn, place, omega, alpha, acceleration):
        """Force and moment about the origin of the base that the link and all beyond it need."""
        force, moment = _newton_euler(self.links[link], turn, place, omega, alpha, acceleration)
        for joint in self.children.get(link, []):
            offset = turn @ _numbers(joint.find("origin"), "xyz")
            there = place + offset
            speed = acceleration + np.cross(alpha, offset) + np.cross(omega, np.cross(omega, offset))
            frame = turn @ rpy(_numbers(joint.find("origin"), "rpy"))
            angle, rate, change = self.state.get(joint.get("name"), (0.0, 0.0, 0.0))
            axis = _numbers(joint.find("axis"), "xyz", "1 0 0")
            axis = axis / max(np.linalg.norm(axis), 1e-300)
            z = frame @ axis
            f, n = self._down(
                joint.find("child").get("link"),
                frame @ _about(axis, angle),
                there,
                omega + z * rate,
                alpha + z * change + np.cross(omega, z) * rate,
                speed,
            )
            if joint.get("name") in self.tau:
                self.tau[joint.get("name")] = z @ (n - np.cross(there, f))
            force, moment = force + f, moment + n
        return force, moment


def _newton_euler(inertial, turn, place, omega, alpha, acceleration):
    if inertial is None:
        return np.zeros(3), np.zeros(3)
    mass = float(inertial.find("mass").get("value"))
    arm = turn @ _numbers(inertial.find("origin"), "xyz")
    frame = turn @ rpy(_numbers(inertial.find("origin"), "rpy"))
    t = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
    rows = [[t["ixx"], t["ixy"], t["ixz"]], [t["ixy"], t["iyy"], t["iyz"]], [t["ixz"], t["iyz"], t["izz"]]]
    tensor = frame @ np.array(rows) @ frame.T
    force = mass * (acceleration + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm)))
    spin = tensor @ alpha + np.cross(omega, tensor @ omega)
    return force, spin + np.cross(place + arm, force)


def _numbers(element, key, default="0 0 0"):
    text = default if element is None else element.get(key, default)
    return np.array([float(word) for word in text.split()])


def rpy(angles):
    """Rz(yaw) Ry(pitch) Rx(roll); an angle written like a right one in ten digits is one."""
    near = [RIGHT * round(x / RIGHT) if abs(x - RIGHT * round(x / RIGHT)) < 1e-9 else x for x in angles]
    roll, pitch, yaw = (_about(np.eye(3)[i], angle) for i, angle in enumerate(near))
    return yaw @ pitch @ roll


def _about(axis, angle):
    cross = np.array([np.cross(axis, e) for e in np.eye(3)]).T
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
