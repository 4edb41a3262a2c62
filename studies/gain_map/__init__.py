"""The certified map over m and k_v for the paper's arm, which the report shows."""
