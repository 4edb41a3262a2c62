"""Fuzzing of the readers of arm files and URDF files: ``python -m tests.fuzz_readers --inputs 100000``."""
