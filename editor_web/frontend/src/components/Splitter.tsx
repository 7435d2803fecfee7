/** The line between two panes, which is dragged to give one of them more room. */
import { Separator } from 'react-resizable-panels'
import classes from './Splitter.module.css'

export function Splitter({ label, isFlat = false }: { readonly label: string; readonly isFlat?: boolean }) {
  return <Separator className={classes.splitter} data-flat={isFlat || undefined} aria-label={label} />
}
