"""Areas of danger against ships that are sailed."""
