"""Decision science: mazes, MDPs, legible policies, observers, rollouts, stimuli."""
