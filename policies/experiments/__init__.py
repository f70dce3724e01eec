"""The paper's simulations, rerun: each a grid of units whose results are kept as they finish."""
