/** The figure of a search that its report has too: how near to failure each run was; a click on a mark chooses its run. */
import type { MouseEvent } from 'react'
import classes from './drawings.module.css'

export interface SearchFigureProps {
  /** SVG of the engine, whose marks have the number of their run; all text in it is escaped. */
  readonly figure: string
  readonly selected: number | undefined
  readonly onSelect: (run: number) => void
}

export function SearchFigure({ figure, selected, onSelect }: SearchFigureProps) {
  const drawn = selected === undefined ? figure : figure.replace(`data-run="${selected}"`, '$& data-selected')

  function choose(event: MouseEvent): void {
    const run = event.target instanceof Element ? event.target.closest('[data-run]')?.getAttribute('data-run') : undefined
    if (run) onSelect(Number(run))
  }

  // The keyboard reaches the same runs in their table.
  return (
    // oxlint-disable-next-line jsx-a11y/click-events-have-key-events, jsx-a11y/no-noninteractive-element-interactions -- as above
    <div
      className={`${classes.drawing} ${classes.figure}`}
      tabIndex={0}
      role="group"
      aria-label="How near to failure each run was"
      onClick={choose}
      dangerouslySetInnerHTML={{ __html: drawn }}
    />
  )
}
