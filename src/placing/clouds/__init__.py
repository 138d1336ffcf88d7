"""Point clouds: files, sampling and preprocessing."""
