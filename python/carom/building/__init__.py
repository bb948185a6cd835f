"""From a case to a model: built, refused, or doubted before its first step."""
