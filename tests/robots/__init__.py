"""Arms: files, models, every arithmetic."""
