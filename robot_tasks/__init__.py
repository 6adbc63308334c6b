"""Robot skills to tune: MuJoCo rollouts of behaviour trees under Cartesian impedance control."""
