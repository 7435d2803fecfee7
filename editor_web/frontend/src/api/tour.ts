/** How far somebody has come in the tour: kept in this browser, so that it can be left and gone on with. */
import { pageStore } from './pageStore'

export interface TourState {
  /** Whether it is on the page now. */
  readonly isOn: boolean
  /** Number of the step it is at, from 0. */
  readonly step: number
  /** The behavior that is made in it; empty before. */
  readonly document: string
  /** Whether somebody has gone through it, or said that he will not. */
  readonly isSettled: boolean
  /** Whether it was just opened: the keyboard goes there once. */
  readonly isFresh: boolean
}

const KEPT = 'flexcell.tour'
const AT_FIRST: TourState = { isOn: false, step: 0, document: '', isSettled: false, isFresh: false }

export const useTour = pageStore<TourState>(() => kept())

/** Begin, or go on where it was left. */
export function openTour(): void {
  setTour({ isOn: true, isSettled: true, isFresh: true })
}

/** Put it away; it is kept how far it came. */
export function leaveTour(): void {
  setTour({ isOn: false, isSettled: true })
}

/** Put it away and forget how far it came. */
export function endTour(): void {
  setTour({ ...AT_FIRST, isSettled: true })
}

export function setTour(change: Partial<TourState>): void {
  useTour.setState(change)
  localStorage.setItem(KEPT, JSON.stringify(useTour.getState()))
}

function kept(): TourState {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(KEPT) ?? 'null')
    return typeof found === 'object' && found !== null ? { ...AT_FIRST, ...(found as Partial<TourState>) } : AT_FIRST
  } catch {
    // What somebody else has written there is no reason not to start.
    return AT_FIRST
  }
}
