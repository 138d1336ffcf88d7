"""What is learned from labelled scenes: Theta, likelihoods and chosen numbers."""
