"""Where dry friction lets an arm rest beside its goal: proved, beside what simulations of it show."""
