"""Paper 000: the wavelet network in its own form."""
