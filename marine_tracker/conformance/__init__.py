"""How the service does under the test conditions of IMO A.823 and MSC.192."""
