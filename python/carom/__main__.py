"""``python -m carom`` is the command ``carom``."""

from carom.cli import main

if __name__ == "__main__":
    main()
