"""The document as text: its elements, attributes and numbers."""
