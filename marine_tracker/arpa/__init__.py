"""The ARPA: motion, CPA and TCPA, acquisition, zones, alarms, trial manoeuvre."""
