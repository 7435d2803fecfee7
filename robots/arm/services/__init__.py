"""The services and the status of an arm; none of them moves it."""
