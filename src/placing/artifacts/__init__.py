"""Files that link the stages: formats, and a reader and a writer for each artifact."""
