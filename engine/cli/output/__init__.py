"""What commands write: progress, reports, findings in the formats of CI systems, JUnit files."""
