"""Scenes full of false plots and of plots that are always there."""
