"""Where the energy of a body is: by the modes in which it vibrates."""
