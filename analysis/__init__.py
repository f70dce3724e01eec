"""Statistics: reading the export, measures, tests, figures, the report."""
