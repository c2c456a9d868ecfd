"""Sections out of label images and meshes: the outline of a slope and its stones."""
