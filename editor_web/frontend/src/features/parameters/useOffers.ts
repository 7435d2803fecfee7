/** What the fields of a form choose from: names of the open cell and entries of its store, asked for where a field names something. */
import { catalogueQuery } from '../../api/catalogueQuery'
import { useAnswer } from '../../api/queryClient'
import { offersFor, type Field } from '../../document/schema'

export function useOffers(fields: readonly Field[]): (field: Field) => readonly string[] | undefined {
  const isNaming = fields.some((field) => field.kind === 'text' && (field.nameKind !== '' || field.entryKind !== ''))
  const { value: catalogue } = useAnswer({ ...catalogueQuery(), enabled: isNaming })
  return (field) => offersFor(field, catalogue)
}
