"""Golden walks: what agents did, step by step, before the library was rebuilt; see `record.py`."""
