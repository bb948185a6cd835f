"""What a results directory holds, as the auditor reads it."""
