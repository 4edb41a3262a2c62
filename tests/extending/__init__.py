"""``docs/extend.md`` as it stands: its files are written, its commands run, its output compared."""
