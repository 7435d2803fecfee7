/** The initials of those who have a node selected on other pages. */
import { Avatar } from '@mantine/core'
import { useOthersAt } from '../api/presence'
import { initialsOf } from '../document/presence'

export interface OthersHereProps {
  /** The behavior that the node belongs to. */
  readonly document: string
  readonly path: string
  /** Whether it stands for what is inside as well. */
  readonly isFolded?: boolean
}

export function OthersHere({ document, path, isFolded = false }: OthersHereProps) {
  return useOthersAt(document, path, isFolded).map(({ page, name }) => (
    <Avatar key={page} size={18} color="initials" name={name} title={`${name} has it selected`} data-other={name}>
      {initialsOf(name)}
    </Avatar>
  ))
}
