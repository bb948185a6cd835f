// A page without a scene: its tables can be saved.
carom.save.offerTables();
document.documentElement.dataset.ready = "true"; // for who waits for the page
