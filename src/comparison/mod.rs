//! What differs between two recipes, two revisions or two datasets, and whether a dataset can be made again.
