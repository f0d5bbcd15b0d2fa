"""What runs leave behind: recordings, CSV files, pictures and pages."""
