"""Paper 003: wavelets and the CS-Kalman filter."""
