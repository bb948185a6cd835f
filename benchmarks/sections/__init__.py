"""The sections of docs/validation.md, one module each with a function `section`."""
