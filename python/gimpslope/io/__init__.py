"""Files that gimpslope writes and reads."""
