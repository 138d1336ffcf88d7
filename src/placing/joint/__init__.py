"""The joint placement of many objects: an integer program with stacks."""
