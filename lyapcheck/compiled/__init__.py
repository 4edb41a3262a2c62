"""Formulas turned into straight-line C, compiled once and kept: speed for sampling, never for a verdict."""
