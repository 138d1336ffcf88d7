"""The data set `thor`: rooms of professional designers, dressed with shapes."""
