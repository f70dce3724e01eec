"""Statistical methods on plain arrays: nothing here knows files, plans or reports."""
