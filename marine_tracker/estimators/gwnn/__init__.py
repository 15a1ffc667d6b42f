"""The estimator `gwnn`: a trained wavelet network that weighs a bank of filters."""
