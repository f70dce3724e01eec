"""The study: web server, database, export, command line."""
