"""Gains for a wanted response: overshoot, settling, torque, rest; searched, tried, confirmed by the gate."""
