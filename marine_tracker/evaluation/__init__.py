"""What users run on data of their own: scores, speed, reports."""
