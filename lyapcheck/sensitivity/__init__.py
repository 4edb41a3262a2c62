"""What the assumed numbers of an arm do to the experiment, and whether they explain what is printed."""
