"""The robot of Section 3.3: its model, where it reaches, how it moves, what is true.

A configuration `q` is (4 + a,) = base x, y [m], base yaw [rad], torso lift [m] and the
joints of the arm [rad]; all other joints stand still at the values of the robot's file.
"""
