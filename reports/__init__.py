"""Pages and figures that a command makes of many runs."""
