"""Rows of one table matched to those of another by their ids."""

from ..types import row_of

__all__ = ['row_of']
