"""The sub-commands of `marine_tracker`: each file has HELP, add_arguments(parser), run(args)."""
