"""Drive trains: motors of a user's own catalogue, gears with efficiency, and the sheet that sizes a drive."""
