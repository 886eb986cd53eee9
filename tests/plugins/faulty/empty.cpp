// Nothing: for the headers that are compiled beside it.
