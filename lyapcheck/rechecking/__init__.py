"""What the checker found, printed, and what it rests on, counted: nothing here decides."""
