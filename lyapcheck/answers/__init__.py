"""One file or folder a question that users ask; each answer is ready for every format of ``output``."""
