/** What is dragged from the library onto the canvas. */

/** Kind of the data that says what is dragged. */
export const ADDITION = 'application/x-flexcell-addition'
