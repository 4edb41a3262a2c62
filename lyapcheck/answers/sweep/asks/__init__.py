"""A file a question: ``ask`` answers some that differ in their gains alone, in their order."""
