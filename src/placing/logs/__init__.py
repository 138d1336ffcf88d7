"""Plans as MCAP in ROS 2 encoding."""
