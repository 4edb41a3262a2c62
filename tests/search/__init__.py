"""All that proposes: boxes, states, constants."""
