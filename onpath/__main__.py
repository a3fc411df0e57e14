"""`python -m onpath` is the command `onpath`."""

from onpath.app.cli.main import main

if __name__ == "__main__":
    main()
