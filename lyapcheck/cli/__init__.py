"""The command line, thin: parse, call, print. The commands are the files of ``commands``."""
