"""What a run left in its directory, to be read and worked with."""
