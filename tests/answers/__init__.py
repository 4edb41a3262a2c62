"""What each question is answered, as data and as documents."""
